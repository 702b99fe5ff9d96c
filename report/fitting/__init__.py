"""Least squares for any workbook: a solver that says how it ended, and models with errors in any variable."""
