"""Creo as a program that draws: a running session, driven through CREOSON's JSON interface."""
