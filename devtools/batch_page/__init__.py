"""A batch's page in a real browser: made-up batches, a browser's driver, and what they measure."""
