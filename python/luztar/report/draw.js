// Draws every figure of the page from the JSON beside it, and fits them to the paper when the page is printed.
(function () {
  "use strict";
  // A4 less its margins at 96 dots per inch.
  var PAPER_WIDTH = 690;
  var figures = JSON.parse(document.getElementById("luztar-figures").textContent);
  var config = {
    responsive: true,
    displaylogo: false,
    modeBarButtonsToRemove: ["lasso2d", "select2d", "autoScale2d"]
  };
  var drawn = [];
  document.querySelectorAll("[data-figure]").forEach(function (place) {
    var figure = figures[place.getAttribute("data-figure")];
    if (!figure) { return; }
    place.textContent = "";
    drawn.push(place);
    Plotly.newPlot(place, figure.data, figure.layout, config);
  });
  window.addEventListener("beforeprint", function () {
    drawn.forEach(function (place) { Plotly.relayout(place, { autosize: false, width: PAPER_WIDTH }); });
  });
  window.addEventListener("afterprint", function () {
    drawn.forEach(function (place) { Plotly.relayout(place, { autosize: true, width: null }); });
  });
  document.documentElement.setAttribute("data-drawn", String(drawn.length));
})();
