"""What results were made with, what became of them, and what is made from them."""
