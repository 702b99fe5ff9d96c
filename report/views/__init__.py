"""What is read: views get finished values and compute nothing."""
