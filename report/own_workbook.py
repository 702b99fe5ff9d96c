"""A user's own workbook: the bytes that were read are what runs, and what it raises is told with its line."""

from __future__ import annotations

import sys
import types
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from .errors import InputError, Location, LoopsheetError, diagnose

if TYPE_CHECKING:
    from ..derivations.equation import Ledger
    from .workbook import Workbook

__all__ = ["own_workbook"]


def own_workbook(path: Path, code: bytes) -> Workbook:
    """Run the user's own code and return the workbook that it declares.

    Parameters
    ----------
    path : Path
        The file, as the user wrote it, for messages.
    code : bytes
        What is run: nothing is read again, no cache is believed and none is left in the user's folder.

    Raises
    ------
    InputError
        It fails, asks to end the program, or declares no workbook; later, a function that it gave the
        workbook does so.
    """
    from ..derivations.equation import Ledger
    from .workbook import Workbook

    own = _Own(path, code)
    found: Workbook = own.guarded("WORKBOOK", own.run, Workbook)()

    def ledger() -> Ledger:
        plain: Ledger = own.guarded("what ledger() returns", found.ledger, Ledger)()
        return replace(plain, checks=tuple(own.guarded("a check", check) for check in plain.checks))

    return replace(
        found,
        ledger=ledger,
        sheet=own.guarded("what sheet() returns", found.sheet),
        check_parameters=own.guarded("what check_parameters() returns", found.check_parameters, str | None),
        curves=found.curves and own.guarded("what curves() returns", found.curves),
        drawn=found.drawn and own.guarded("what drawn() returns", found.drawn),
    )


@dataclass(frozen=True)
class _Own:
    path: Path
    code: bytes

    def run(self) -> Any:
        # Two folders may each have a workbook.py; a class finds its module by its name.
        module = types.ModuleType(f"loopsheet_workbook_{self.path.resolve().as_posix()}")
        module.__file__ = str(self.path)
        sys.modules[module.__name__] = module
        exec(compile(self.code, str(self.path), "exec", dont_inherit=True), vars(module))
        if not hasattr(module, "WORKBOOK"):
            self._refuse("it declares no WORKBOOK")
        return module.WORKBOOK

    def guarded(self, what: str, function: Callable[..., Any], kind: Any = object) -> Callable[..., Any]:
        """The function, with what it raises told as the user's own; and that it returns what it should."""

        def call(*arguments: Any) -> Any:
            try:
                found = function(*arguments)
            except (KeyboardInterrupt, LoopsheetError):
                raise
            except BaseException as error:  # sys.exit() too: it must not end us as if all were well
                self._refuse(f"{type(error).__name__}: {error}".removesuffix(": "), error)
            if not isinstance(found, kind):
                self._refuse(f"{what} is no {getattr(kind, '__name__', kind)}")
            return found

        return call

    def _refuse(self, reason: str, error: BaseException | None = None) -> NoReturn:
        """Raise a finding at the last line of the user's file that the error passed through."""
        line = getattr(error, "lineno", None) if isinstance(error, SyntaxError) else None
        traceback = None if error is None else error.__traceback__
        while traceback is not None:
            if traceback.tb_frame.f_code.co_filename == str(self.path):
                line = traceback.tb_lineno
            traceback = traceback.tb_next
        source = self.code.decode("utf-8", "replace").splitlines()
        shown = source[line - 1] if line is not None and 0 < line <= len(source) else ""
        file, text = self.path.as_posix(), shown.strip()
        at = Location(file, line, shown.index(text) + 1, len(text), shown) if text else Location(file)
        raise InputError(diagnose("LS213", at, text=self.path.name, reason=reason)) from error
