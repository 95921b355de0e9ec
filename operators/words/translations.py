"""Translations of what the artist reads, as `bpy.app.translations.register` takes them."""

# By locale ("de_DE"): of (context, English), which is "*" and a template of templates.py.
TRANSLATIONS: dict[str, dict[tuple[str, str], str]] = {}
