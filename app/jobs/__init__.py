"""Long work: jobs are rows in the database, run outside the server's process, and report progress."""
