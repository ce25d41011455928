"""Logs, metrics, traces and readiness checks for an operator."""
