"""What a version of a template does to the designs that use another one; nothing is written."""
