"""The list of designs."""
