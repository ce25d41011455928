"""Finite-element analyses on pages of models, designs and reports."""
