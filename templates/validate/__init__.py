"""Published bearings, cranks and engines beside our results: `python -m templates.validate` prints them."""
