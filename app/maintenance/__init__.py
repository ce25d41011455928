"""Maintain a service's data from the command line: check, repair, back up, restore."""
