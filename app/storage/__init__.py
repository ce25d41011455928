"""Storage: the database with its one writer, the artifacts, and the folder that holds both."""
