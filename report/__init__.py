"""The sheet and all that is made from it."""
