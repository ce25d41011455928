"""The REST interface: reading requests, problems, waiting for jobs."""
