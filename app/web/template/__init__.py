"""The page of a template, with a form to try it."""
