"""The lookup as a program for renderers: written once, in restricted Python, and printed in several languages."""
