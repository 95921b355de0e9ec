"""The sidebar's panels, lists and menus; draw() reads stored text and computes nothing."""
