"""Translations of what the artist reads, as `bpy.app.translations.register` takes them."""

# By locale ("de_DE"): of (context, English), which is "*" and one of `templates`.
TRANSLATIONS: dict[str, dict[tuple[str, str], str]] = {}
