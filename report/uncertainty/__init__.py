"""The uncertainty of every number: what is known of the inputs, propagated along the sheet's derivatives."""
