"""The modules that a process imports in advance if it only checks files of a team."""

CHECKS = ("cad.model", "app.catalogue.check")
