"""The pages: what the REST interface says, as an engineer reads it."""
