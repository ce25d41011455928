"""The pages: what the services answer, as an engineer reads it."""
