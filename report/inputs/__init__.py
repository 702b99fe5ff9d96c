"""From the files of a report folder to typed inputs: numbers and units as text, tables, what a user says."""
