"""Folders that are carried away and read again: crates, results beside one another, what one starts from."""
