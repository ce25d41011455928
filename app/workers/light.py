"""The modules to import in processes that check a team's files."""

CHECKS = ("cad.model", "app.catalogue.check")
