"""Import Mathcad sheets as worksheets: unpack and read them safely, translate each region, verify the values.

A file goes through `package` (its parts), `trees` (XML), `prime` or `legacy` (regions), `translation` (the
text of a worksheet) and `verification` (its values compared with Mathcad's own). `job` runs all of these in
one process.
"""
