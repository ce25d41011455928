"""The pages that solve a design or a template for one input."""
