"""The service: the only place that knows HTTP, SQL and processes."""
