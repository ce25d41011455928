"""Maintenance of a data folder from the command line: check, repair, back up, restore."""
