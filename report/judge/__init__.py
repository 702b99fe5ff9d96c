"""The judges of the engines and of the inputs: bounds, enclosures, what is odd."""
