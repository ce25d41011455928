"""Every route of the REST interface, by resource."""
