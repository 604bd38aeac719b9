"""Operating beambench: nights and their history, the site, campaigns, publishing, and releases.

Each part is a package: history, site, nightly, campaign, publish, referee, release. Each imports
only those before it.
"""
