"""The page of a design at its newest revision, with the forms that edit it."""
