"""What an author of a workbook writes, a class whose body declares it, and what is made of that.

`words` are what such a body is written with; the other modules follow a line from `body`, which reads it, to
`made`, which makes the workbook.
"""
