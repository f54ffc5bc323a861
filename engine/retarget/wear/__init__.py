# SPDX-License-Identifier: GPL-3.0-or-later
"""Clothes, hair and accessories of one body, fitted to another."""
