"""What the processes import that check files of a team, named where nothing is imported for it."""

CHECKS = ("cad.model", "app.catalogue.check")
