"""Storage: the database with its single writer, the artifacts, and the folder that contains both."""
