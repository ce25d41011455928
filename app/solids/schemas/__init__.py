"""Response schemas for models, builds and analyses."""
