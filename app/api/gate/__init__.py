"""The checks of a request before its route: hosts, origins, sizes, times."""
