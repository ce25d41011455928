"""The effect of a template version on designs that use another version; nothing is written."""
