"""The pages of the service, for engineers."""
