"""The modules that processes which check a team's files import in advance."""

CHECKS = ("cad.model", "app.catalogue.check")
