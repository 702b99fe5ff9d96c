"""What is read: views get finished values and compute nothing."""

FORMATS = {
    "html": ("loopsheet.report.views.html", "report.html", "svg"),
    "latex": ("loopsheet.report.views.latex", "report.tex", "pdf"),
    "xlsx": ("loopsheet.report.views.xlsx", "report.xlsx", ""),
    "json": ("loopsheet.report.views.json", "values.json", ""),
    "pdf": ("loopsheet.report.views.pdf", "report.pdf", "pdf"),
}
"""Name of a format -> the module that writes it, its file, and the form of the figures that it shows."""

ON_REQUEST = ("pdf",)
"""What nobody gets who does not ask for it."""
