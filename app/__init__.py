"""The Crankwright service. No other package uses HTTP, SQL or processes."""
