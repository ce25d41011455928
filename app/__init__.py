"""The service. No other package knows HTTP, SQL or processes."""
