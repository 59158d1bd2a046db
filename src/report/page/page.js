const shownReport = JSON.parse(document.getElementById("data").textContent);
if (shownReport.kind === "workbench") startWorkbench(document.getElementById("page"));
else showReport(document.getElementById("page"), shownReport);
