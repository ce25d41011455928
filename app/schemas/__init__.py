"""What the Pydantic models of all resources are made of."""
