"""Writes every case of this folder: python3 generate.py   (standard library only).

The decks and their references are the test data; this program is how they were made and how more are made."""
import contact, curved, friction, self_contact, structural, ties

structural.write()
contact.write()
friction.write()
curved.write()
ties.write()
self_contact.write()
