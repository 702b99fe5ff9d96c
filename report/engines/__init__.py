"""What calculates a sheet: one module a target, each generated from the algebra."""
