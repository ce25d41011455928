"""Logs, metrics and traces for an operator."""
