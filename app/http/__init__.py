"""Checks that apply to all requests: hosts, keys, sizes, times, strict parsing; and problem responses."""
