"""What there is to use: templates and their versions."""
