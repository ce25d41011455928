"""Mathcad sheets as worksheets: unpacked and read safely, translated region by region, verified by value.

A file goes through `package` (its parts), `trees` (XML), `prime` or `legacy` (regions), `translation` (the
text of a worksheet) and `verification` (its values against Mathcad's own). `job` runs all of it in a
process.
"""
