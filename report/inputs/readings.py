"""Repeated readings of one quantity, or of several together: what they say of their own errors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from math import copysign, sqrt
from typing import TYPE_CHECKING, Any

from ..messages.errors import listing, suggest
from .keys import LEFT_OUT
from .parameters import wrong_type
from .stated import covariance

if TYPE_CHECKING:
    from ..quantity import Printed
    from .measurements import Measurements
    from .tables import TomlTables


def correlations_of(columns: Mapping[str, Sequence[Printed]]) -> dict[tuple[str, str], float]:
    """The correlation coefficients of paired readings; of none that are all the same."""
    own = {name: covariance(column, column) for name, column in columns.items()}
    found = {}
    for one, other in combinations(columns, 2):
        if own[one] and own[other]:
            both = covariance(columns[one], columns[other])
            found[one, other] = copysign(sqrt(both**2 / (own[one] * own[other])), both)
    return found


def read_paired(
    tables: TomlTables,
    section: str,
    numbers: Mapping[str, Sequence[Printed | None]],
    measured: Sequence[Measurements],
) -> tuple[str, ...]:
    """The columns of repeated readings that were taken together; none, with a finding, if that is wrong."""
    path = (section, "paired")
    written: Any = tables.toml.data[section]["paired"]
    if not isinstance(written, list) or not all(isinstance(name, str) for name in written):
        wrong_type(tables.toml, tables.findings, path, "a list of columns", 'paired = ["V", "I"]')
        return ()
    columns = [name for name, column in numbers.items() if len(column) > 1]
    beside = next((table.measured for table in measured if written and written[0] in table.measured), {})
    columns = [name for name in columns if name in beside or not beside]
    wrong = [name for n, name in enumerate(written) if name not in columns or name in written[:n]]
    if wrong or len(written) < 2:
        reason = f"paired readings are two or more of {listing(columns)}"
        if not columns:
            rows = (
                "there is one row"
                if any(numbers[name] for table in measured for name in table.measured)
                else "there are none"
            )
            reason = f"paired readings are of two columns or more with two rows or more, and {rows}"
        elif wrong:
            odd = "is named twice" if wrong[0] in columns else "is no measured column with two rows or more"
            reason = f"paired readings: '{wrong[0]}' {odd}"
        hint = suggest(wrong[0], columns) if wrong and wrong[0] not in columns else ""
        tables.findings.add("LS434", tables.toml.value(*path), reason=reason, suggestion=hint)
        return ()
    if gaps := [name for name in written if None in numbers[name]]:
        reason = f"paired readings were taken together, and {gaps[0]} has not one in each row"
        hint = f"say in a column '{LEFT_OUT}' why such a row takes no part"
        tables.findings.add("LS434", tables.toml.value(*path), reason=reason, suggestion=hint)
        return ()
    return tuple(written)
