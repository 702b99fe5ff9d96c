"""What was found, as finished data for all who show it, and the sentences about it."""
