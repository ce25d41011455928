"""Library: tables of bearing materials, oils and surface finishes, each value with its source."""
