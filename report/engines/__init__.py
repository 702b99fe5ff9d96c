"""What calculates a sheet: one module a target, each generated from the algebra."""

ENGINES = {
    "numpy": "loopsheet.report.judge.readers:of_case",
    "JavaScript": "loopsheet.report.judge.readers:run_javascript",
    "xlsx": "loopsheet.report.judge.readers:run_workbook",
}
"""Name of an engine that is judged -> what tells, of a Case, what it computes; the first needs no program."""
