"""Builds with their files, measurements and analyses, all stored under the key of the build."""
