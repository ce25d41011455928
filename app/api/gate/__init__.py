"""What a request passes before a route: hosts, origins, sizes, times."""
