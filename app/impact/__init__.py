"""The effect of a version of a template on the designs that use another one; nothing is written."""
