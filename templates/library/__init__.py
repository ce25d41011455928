"""Library: bearing materials, oils and surface finishes as tables, each value with its source."""
