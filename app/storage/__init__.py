"""What outlives the process: the database with its one writer, the artifacts, the folder that holds both."""
