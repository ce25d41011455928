"""Jobs for long work: rows in the database, run outside the server's process, with progress reports."""
