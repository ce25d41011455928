"""Published bearings, cranks and engines beside our results: the page docs/validation.md and its script."""
