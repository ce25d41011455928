"""The page of a study, and the form for a new one."""
