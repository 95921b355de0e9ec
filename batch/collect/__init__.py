"""What is made of a batch's results: table.csv, the contact sheet, and a page to look at them."""
