# SPDX-License-Identifier: GPL-3.0-or-later
"""Every proxy is made by its name, is explained, and has the properties that scripts and state files rely on.

proxies.json lists them: names are never taken away nor changed. `proxies.py --write` adds what is new."""
import json
import pathlib
import sys

from support import expect, run, servermanager, simple

FROZEN = pathlib.Path(__file__).with_name("proxies.json")
GROUPS = ["sources", "filters", "writers", "experimental_writers"]


def definitions():
    manager = servermanager.ProxyManager().SMProxyManager.GetProxyDefinitionManager()
    for group in GROUPS:
        found = manager.NewSingleGroupIterator(group)
        found.GoToFirstItem()
        while not found.IsDoneWithTraversal():
            if found.GetProxyName().startswith("Semsurf"):
                yield group, found.GetProxyName()
            found.GoToNextItem()


def present():
    proxies = {}
    for group, name in definitions():
        proxy = servermanager.ProxyManager().SMProxyManager.NewProxy(group, name)
        properties = {}
        iterator = proxy.NewPropertyIterator()
        iterator.Begin()
        while not iterator.IsAtEnd():
            item = iterator.GetProperty()
            if not item.GetIsInternal() and not item.GetInformationOnly():
                properties[iterator.GetKey()] = item.GetXMLLabel()
            iterator.Next()
        proxies[f"{group}/{name}"] = {"label": proxy.GetXMLLabel(), "properties": dict(sorted(properties.items()))}
    return dict(sorted(proxies.items()))


def names_are_frozen():
    frozen, now = json.loads(FROZEN.read_text()), present()
    for name, proxy in frozen.items():
        expect(name in now, f"{name} is gone")
        expect(now[name]["label"] == proxy["label"], f"{name} is called {now[name]['label']}, not {proxy['label']}")
        for key, label in proxy["properties"].items():
            got = now[name]["properties"].get(key)
            expect(got == label, f"{name}: the property {key} is called {got}, not {label}")
    expect(now == frozen, "there are new names: run this test with --write, and look at what changes")


def all_are_explained():
    manager = servermanager.ProxyManager().SMProxyManager
    for group, name in definitions():
        proxy = manager.NewProxy(group, name)
        about = proxy.GetDocumentation()
        expect(len(about.GetDescription() or "") > 60, f"{name} has no description")
        expect(about.GetShortHelp(), f"{name} has no short help")
        iterator = proxy.NewPropertyIterator()
        iterator.Begin()
        while not iterator.IsAtEnd():
            item = iterator.GetProperty()
            if not item.GetIsInternal() and not item.GetInformationOnly():
                expect(item.GetDocumentation() and item.GetDocumentation().GetDescription(),
                       f"{name}: the property {iterator.GetKey()} is not explained")
            iterator.Next()


def all_can_be_made():
    for group, name in definitions():
        label = servermanager.ProxyManager().SMProxyManager.NewProxy(group, name).GetXMLLabel()
        if group in ("sources", "filters"):
            python = "".join(c for c in label if c.isalnum())
            expect(hasattr(simple, python), f"paraview.simple has no {python}")


def write():
    FROZEN.write_text(json.dumps(present(), indent=1) + "\n")


if __name__ == "__main__":
    run(*([write] if "--write" in sys.argv else [names_are_frozen, all_are_explained, all_can_be_made]))
