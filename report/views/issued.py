"""What a view may write from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ..result.result import Report


@dataclass(frozen=True)
class Issued:
    """A finished report, and what is made of it for several views at once."""

    report: Report
    pictures: Mapping[str, bytes]
    """The files of its figures, in the forms that the formats show."""
    program: str = ""
    """The sheet for a page that recalculates itself."""
    workbook: bytes = b""
    """The sheet as an xlsx file."""

    def figures(self, form: str) -> dict[str, bytes]:
        """The figures of a form by their names."""
        ending = f".{form}"
        return {
            name.removesuffix(ending): each for name, each in self.pictures.items() if name.endswith(ending)
        }
