"""Mark of a record's fields that report.json leaves out."""

OMIT_NONE = {"omit none": True}  # of a field whose key report.json lacks where there is no value
