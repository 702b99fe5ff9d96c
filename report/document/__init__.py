"""A report as blocks and typed inlines: what is said, in which order, and nothing of how a format sets it."""
