"""The shipped workbooks: one module a method, one line each in the registry."""

from __future__ import annotations

SHIPPED = {
    "contact_models": "loopsheet.report.workbooks.contact_models",
    "soft_impact": "loopsheet.report.workbooks.soft_impact",
}
"""Name in report.toml -> module that has it as ``WORKBOOK``."""
