"""Calculate how a template version would change designs that use another version, without saving anything."""
