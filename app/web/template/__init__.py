"""The page of a template, with a form to evaluate it."""
