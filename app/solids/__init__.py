"""Builds, with their files, measurements and analyses: each is stored under the key of the build."""
