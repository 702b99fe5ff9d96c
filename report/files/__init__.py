"""The forms of the files that are written and read back: a struct each, which is its JSON schema too."""
