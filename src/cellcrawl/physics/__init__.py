"""The model's pointwise laws, once, for every solver."""
