"""What a batch is made of: clips, recipes with ranges, tables of pairs; and its manifest."""
