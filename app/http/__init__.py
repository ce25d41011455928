"""Checks common to all requests: hosts, keys, sizes, times, strict parsing, problems."""
