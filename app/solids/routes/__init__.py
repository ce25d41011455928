"""Routes of models, builds, artifacts and analyses."""
