"""Base classes and types of the Pydantic models of all resources."""
