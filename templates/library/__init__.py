"""Library: bearing materials, oils and surface finishes as cited tables, each value with its source."""
