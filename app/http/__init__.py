"""What every request passes, whatever its resource: hosts, keys, sizes, times, strict reading, problems."""
