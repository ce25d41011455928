"""Building blocks of the Pydantic models of every domain."""
