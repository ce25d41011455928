"""What the processes import that check files of a team, named where nothing is imported for it."""

CHECKS = ("cad.model", "app.catalogue.checking")
FOLDERS = "CRANKWRIGHT_TEMPLATE_FOLDERS"
"""The setting that names the folders of a team."""
