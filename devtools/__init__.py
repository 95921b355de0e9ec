"""What dev.py does; never part of the extension's zip."""
