"""The language of templates: declare a template, read its inputs, and evaluate it at every level."""
