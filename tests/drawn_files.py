"""Drawings of a report as files."""

from loopsheet.report.result.result import Report
from loopsheet.report.views import figures

__all__ = ["pdf_of", "svg_of"]


def svg_of(report: Report, name: str) -> str:
    """A drawing as SVG text."""
    return figures.files(report, name, ["svg"])["svg"].decode()


def pdf_of(report: Report, name: str) -> bytes:
    """A drawing as a PDF page of its own size."""
    return figures.files(report, name, ["pdf"])["pdf"]
