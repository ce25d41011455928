"""Run the processes of a team on one machine, for trials and tests: PostgreSQL, S3, Dask, and servers."""
