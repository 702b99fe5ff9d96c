"""What is concluded from a sheet's values: fits, uncertainty, referee, loops."""
