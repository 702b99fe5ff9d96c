"""The cells of a sheet: how many there are, their values and marks, their units, where they stand."""
